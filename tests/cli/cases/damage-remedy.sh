# What is said of a damaged archive names the material, or the way to what is left of it.
fixture alpha beta gamma
build -q -o good.bpk *.binary
damage good.bpk bad.bpk beta
code brdfpack subset -o out.bpk bad.bpk
code brdfpack merge -o out.bpk bad.bpk
code brdfpack verify bad.bpk
head -c 3000 good.bpk >cut.bpk
code brdfpack list cut.bpk
code brdfpack merge -o out.bpk good.bpk cut.bpk
code build --update -o cut.bpk alpha.binary
[ ! -e out.bpk ] && echo "nothing was written"
code build -o out.bpk good.bpk
code build -o out.bpk --manifest missing.tsv alpha.binary
mkdir empty
code build -o out.bpk empty
