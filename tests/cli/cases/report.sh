# A page of an archive: whole, escaped, with and without measured files; what is damaged is named and the rest shown.
VECTORS=$(dirname "$0")/../../../format-spec/vectors
fixture alpha beta
cp alpha.binary "a <b> \"c\" & 'd'.binary"
build -q -o out.bpk .
brdfpack report -q -o page.html out.bpk
grep -c '<section class=material' page.html
grep -o '<bdi>a [^/]*</bdi>' page.html | sort | uniq -c | sed 's/^ *//'
grep -c '<b> ' page.html || true
tail -n 1 page.html
# the same for any number of workers
brdfpack report -q -j1 -o again.html out.bpk
cmp page.html again.html
# one lighting, one material, its measured file
brdfpack report -q --light env --measured . -o one.html out.bpk beta
grep -o '<figure class=light-[a-z]*>' one.html
grep -o 'measured, decoded, difference ×10; [0-9]' one.html
grep -o '<tbody><tr><th scope=row>0<td>' one.html # layers, counted as list does
mkdir nothing
brdfpack report -q --measured nothing -o alone.html out.bpk beta
grep -o 'not compared: there is no measured file of that name' alone.html
mkdir some && cp beta.binary some
code brdfpack report -q --measured some -o some.html out.bpk
# a damaged record: the second of three
damage out.bpk damaged.bpk alpha
code brdfpack report -q -o damaged.html damaged.bpk
grep -c '<section class=material' damaged.html
grep -o 'data-name="alpha"><span class="ball hole"' damaged.html
grep -o '<section id=verify.*</h3>' damaged.html
grep -c '<li><bdi>alpha</bdi>: ' damaged.html
# a damaged page of the index: what comes before it is shown
cp "$VECTORS/bad-leaf-twice.bpk" .
code brdfpack report -q -o leaf.html bad-leaf-twice.bpk
grep -o '[0-9]* materials, [0-9]* of them here' leaf.html
grep -c '<li class=tile' leaf.html
ls
