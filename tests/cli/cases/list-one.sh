# With a name: everything about that material.
fixture alpha
build --profile paper -o out.bpk .
brdfpack list out.bpk alpha | sed -E '/SHA-256/!s/-?[0-9][0-9.e+-]*/N/g; s/  +/ /g'
sha256sum alpha.binary
build -o spectral.bpk .
brdfpack list spectral.bpk alpha | grep -E 'profile|layer|section' | sed -E 's/-?[0-9][0-9.e+-]*/N/g; s/  +/ /g'
