# extract refuses names that exist: all are named and nothing is written, unless they hold what would be written, or by --force.
fixture alpha beta gamma
build -q -o m.bpk .
sum() { sha256sum alpha.binary beta.binary gamma.binary; }
sum >before
rm gamma.binary
code brdfpack extract m.bpk
[ -e gamma.binary ] || echo "nothing was written"
fixture gamma
sum | cmp - before && echo "the measured files are as they were"
code brdfpack extract -C x m.bpk beta
touch -d 2000-01-01 x/beta.binary
code brdfpack extract -C x m.bpk
stat -c '%n %y' x/beta.binary | cut -c 1-24
code brdfpack extract --plain -C x m.bpk alpha
code brdfpack extract --format json -C x m.bpk alpha
code brdfpack extract --format json -C x m.bpk
echo '{}' >x/alpha.json
code brdfpack extract --format json -C x m.bpk
head -c 100 x/alpha.binary >cut && mv cut x/alpha.binary
printf x >>x/gamma.binary
mkdir -p y/alpha.binary && ln -s nowhere y/beta.binary
code brdfpack extract -C x m.bpk
code brdfpack extract -C y m.bpk
code brdfpack extract --force -C y m.bpk
code brdfpack extract --force -C x m.bpk
code brdfpack extract -C x m.bpk
ls -A x y
code brdfpack extract --force m.bpk
sum | cmp -s - before || echo "replaced by force"
