# Files for renderers: read back by a reader of its own, drawn, and compared with the record's own values; existing files, sizes, options.
fixture alpha zero
build -q -o m.bpk .
top=$(cd "$(dirname "$0")/../../.." && pwd)
python3 "$top/scripts/read_bpk.py" decode m.bpk alpha >alpha.json
python3 "$top/scripts/read_bpk.py" decode m.bpk zero >zero.json
code brdfpack extract --format bsdf -C x m.bpk
code brdfpack extract --format mbsdf -C x m.bpk
code brdfpack extract --format bsdf --spectral -C y m.bpk
for file in x/alpha.bsdf x/zero.bsdf x/alpha.mbsdf x/zero.mbsdf y/alpha.bsdf; do
	name=${file#*/}
	python3 "$top/tests/renderer_files.py" "${name%.*}.json" "$file" 48
done
# what is there stays when it is the same, and is refused when it is not; --force replaces it
touch -d 2000-01-01 x/alpha.bsdf
code brdfpack extract --format bsdf -C x m.bpk
stat -c '%n %y' x/alpha.bsdf | cut -c 1-23
code brdfpack extract --format bsdf --size 100k -C x m.bpk alpha
code brdfpack extract --format bsdf --size 100k --force -C x m.bpk alpha
[ "$(stat -c %s x/alpha.bsdf)" -le 100000 ] && echo "at most 100 kB"
code brdfpack extract --format bsdf --size 20k -C x m.bpk
code brdfpack extract --format bsdf --spectral --size 120k -C x m.bpk
code brdfpack extract --format mbsdf --size 98303 -C x m.bpk
code brdfpack extract --format bsdf --size 2G -C x m.bpk
code brdfpack extract --format bsfd m.bpk
code brdfpack extract --format openexr m.bpk
code brdfpack extract --spectral m.bpk
code brdfpack extract --format mbsdf --spectral m.bpk
code brdfpack extract --size 1M m.bpk
code brdfpack extract --format bsdf --plain m.bpk
mkdir z && touch z/taken
code brdfpack extract --format bsdf -C z/taken m.bpk
ls -A x y z
