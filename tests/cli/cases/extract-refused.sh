# A target that is a file, or a name that is not there.
fixture alpha
build -o out.bpk .
touch file
code brdfpack extract -C file out.bpk
code brdfpack extract -C x out.bpk alhpa
ls
