# An output that cannot be made is refused before any work: no folder, no permission, a link to nothing, a device, too long a name.
fixture alpha beta
build -q -o a.bpk .
mkdir closed folder
ln -s nowhere dangling.bpk
ln -s nowhere dangling.png
long=$(printf 'x%.0s' {1..252})
export BRDFPACK_TEST_CRASH=alpha
for output in no/such/out.bpk dangling.bpk folder /dev/null folder/ new/ "$long.bpk"; do
	code build -o "$output" .
	code brdfpack merge -o "$output" a.bpk
done 2>&1 | sed "s/$long/LONG/"
code brdfpack subset -o dangling.bpk a.bpk
code brdfpack recover -o dangling.bpk a.bpk
code brdfpack render -o dangling.png a.bpk alpha
code brdfpack show -o dangling.png a.bpk alpha
code build --force -o dangling.bpk .
chmod a-w closed
code unprivileged build --any-lattice -o closed/out.bpk .
code unprivileged merge -o closed/out.bpk a.bpk
code unprivileged render -o closed/out.png a.bpk alpha
code unprivileged extract -C closed a.bpk
ls -A . closed folder
