# A name that is not there: the nearest spelling, exit 1; the others are shown.
fixture alpha beta
build -o out.bpk .
code brdfpack list --json out.bpk alhpa beta nothing-like-it | cut -c 1-15
