# A folder that can be written but not read cannot be synced: the archive is written, and a warning says so.
fixture alpha
mkdir blind
chmod 300 blind
code unprivileged build --any-lattice -o blind/out.bpk alpha.binary
code unprivileged merge -o blind/merged.bpk blind/out.bpk
code unprivileged subset -o blind/subset.bpk blind/out.bpk | sed "s/, .*//"
code unprivileged recover -o blind/saved.bpk blind/out.bpk
code unprivileged build --any-lattice -q -o blind/quiet.bpk alpha.binary
chmod 700 blind
ls -A blind
for name in merged subset saved quiet; do cmp blind/out.bpk blind/$name.bpk; done
