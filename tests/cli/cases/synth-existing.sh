# synth refuses names that exist and differ, all of them before it writes; what it wrote itself may stay.
brdfpack synth --lattice 4x4x4 demo
ls demo | wc -l
echo measured >demo/nylon.binary
names=$(ls demo | head -n 2)
for name in $names; do echo mine >"demo/$name"; done
rm demo/wine-velvet.binary
code brdfpack synth --lattice 4x4x4 demo
[ -e demo/wine-velvet.binary ] || echo "nothing was written"
rm demo/nylon.binary
code brdfpack synth --force --lattice 4x4x4 demo
code brdfpack synth --lattice 4x4x4 demo
code brdfpack synth --clean --lattice 4x4x4 demo 2>&1 | tail -n 1
ls demo | wc -l
