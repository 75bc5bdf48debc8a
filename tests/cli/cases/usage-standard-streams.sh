# Standard input and output are no files here, and nothing called "-" appears by mistake.
fixture alpha
build -o a.bpk alpha.binary
for words in "build -o - alpha.binary" "build -o x.bpk -" "build --output=- ." "build --manifest - -o x.bpk ." "list -" "extract -C - a.bpk" "extract a.bpk -" \
	"verify -" "subset -o - a.bpk" "merge -o x.bpk a.bpk -" "recover -o - a.bpk" "synth -" "render -o - a.bpk alpha" "show -o - a.bpk alpha" "compare a.bpk -"; do
	echo "$words: $(code brdfpack $words)"
done
code brdfpack list a.bpk -- -
cp a.bpk ./-
code brdfpack verify ./-
ls
