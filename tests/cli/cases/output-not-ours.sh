# A file that brdfpack did not make is not replaced, by any command, unless by --force; what it made is.
fixture alpha beta
build -q -o a.bpk .
echo precious >thesis.tex
echo precious >photo.png
echo precious >drawing.svg
echo precious >radiance.pfm
: >empty.bpk
# no work is done before it is refused: a worker would crash on alpha
export BRDFPACK_TEST_CRASH=alpha
code build -o thesis.tex .
code build -o empty.bpk .
code build --update -o thesis.tex .
unset BRDFPACK_TEST_CRASH
code brdfpack merge -o thesis.tex a.bpk
code brdfpack subset -o thesis.tex a.bpk
code brdfpack recover -o thesis.tex a.bpk
code brdfpack render -o photo.png a.bpk alpha
code brdfpack render -o radiance.pfm a.bpk alpha
code brdfpack show -o drawing.svg a.bpk alpha
code brdfpack show -o photo.png a.bpk alpha
# an archive is no picture, a picture no archive
cp a.bpk archive.png && code brdfpack render -o archive.png a.bpk alpha
code brdfpack render --size 8 -o sphere.png a.bpk alpha
code brdfpack merge -o sphere.png a.bpk
# another program's picture is not ours, ours is
python3 - <<'END'
data = open("sphere.png", "rb").read()
open("other.png", "wb").write(data[:33] + data[33 + 12 + 17:])
END
code brdfpack render --size 8 -o other.png a.bpk alpha
code brdfpack render --size 9 -o sphere.png a.bpk beta
code brdfpack show -o figure.svg a.bpk alpha
code brdfpack show -o figure.svg a.bpk beta
code brdfpack show -o sphere.png a.bpk beta
cat thesis.tex photo.png drawing.svg radiance.pfm
for command in "merge -q" "subset -q" recover; do code brdfpack $command --force -o thesis.tex a.bpk; cmp a.bpk thesis.tex; echo precious >thesis.tex; done
code build -q --force -o thesis.tex . && cmp a.bpk thesis.tex
code brdfpack render --force --size 8 -o radiance.pfm a.bpk alpha
code brdfpack show --force -o drawing.svg a.bpk alpha
ls -A
