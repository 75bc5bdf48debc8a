# The demo materials: at least twelve MERL files, the same every time, and they pack.
code brdfpack synth --lattice 6x6x8 new/folder
brdfpack synth --lattice 6x6x8 again
[ "$(ls new/folder | wc -l)" -ge 12 ] && echo "twelve or more"
diff -r new/folder again && echo same
code build -o out.bpk again
code brdfpack synth --lattice 3x6x8 x
code brdfpack synth --lattice 6x6 x
touch file
code brdfpack synth file
