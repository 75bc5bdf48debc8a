# Archives joined in name order; the same bytes as building at once; doubles are refused, or replaced by the last.
fixture alpha beta gamma
build -o all.bpk .
build -o a.bpk alpha.binary gamma.binary
build -o b.bpk beta.binary
brdfpack merge -o joined.bpk b.bpk a.bpk
cmp all.bpk joined.bpk && echo "the same as one build"
code brdfpack merge -o none.bpk a.bpk all.bpk
[ ! -e none.bpk ] && echo "nothing was written"
cp beta.binary alpha.binary
build -o new.bpk alpha.binary
brdfpack merge --replace -o replaced.bpk all.bpk new.bpk
brdfpack extract -C x replaced.bpk alpha
brdfpack extract -C y all.bpk beta
cmp x/alpha.binary y/beta.binary && echo "the last one's is there"
brdfpack merge -q --force -o b.bpk b.bpk a.bpk
cmp all.bpk b.bpk && echo "an output may be an input, by force"
code brdfpack merge -o out.bpk a.bpk missing.bpk
code brdfpack merge -o no/such/folder.bpk a.bpk
code brdfpack merge a.bpk
code brdfpack merge -o out.bpk
