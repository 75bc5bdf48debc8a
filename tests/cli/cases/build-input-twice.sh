# Of an input that is given twice the materials count once, and the text of its licence is named once.
mkdir mix
fixture alpha beta
mv alpha.binary beta.binary mix
echo "made up; do what you like" >mix/LICENSE
build -o once.bpk mix
build -o out.bpk mix mix
cmp once.bpk out.bpk && echo same
