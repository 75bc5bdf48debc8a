# What cannot be made: a message that says why, and no file; an older page stays.
fixture alpha
build -q -o out.bpk .
code brdfpack report out.bpk
code brdfpack report -o a.png out.bpk
code brdfpack report -o a.html
code brdfpack report -o a.html --light sun out.bpk
code brdfpack report -o a.html -j 0 out.bpk
code brdfpack report -o a.html nowhere.bpk
code brdfpack report -o a.html alpha.binary
code brdfpack report -o a.html out.bpk alhpa
code brdfpack report -o a.html --measured nowhere out.bpk
code brdfpack report -o missing/a.html out.bpk
mkdir elsewhere
cp "$BRDFPACK" elsewhere/brdfpack # where no viewer is
code elsewhere/brdfpack report -o a.html --embed out.bpk
ls *.html 2>/dev/null
# no material at all: a page that says so
cp "$(dirname "$0")/../../../format-spec/vectors/good-empty.bpk" .
code brdfpack report -q -o empty.html good-empty.bpk
grep -o 'There is no material in this archive' empty.html
# what brdfpack did not make is not replaced, unless it is told to; a page of its own is
echo mine >mine.html
code brdfpack report -q -o mine.html good-empty.bpk
cat mine.html
code brdfpack report -q -o empty.html good-empty.bpk
code brdfpack report -q --force -o mine.html good-empty.bpk
cmp mine.html empty.html
# a disk that is full leaves the older page
cp empty.html full.html
(
	ulimit -f 8 # blocks of 1024 bytes
	trap '' XFSZ
	code brdfpack report -q -o full.html out.bpk
)
cmp full.html empty.html && echo untouched
