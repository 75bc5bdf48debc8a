# An archive without a fault.
fixture alpha beta
build -o out.bpk .
code brdfpack verify out.bpk
code brdfpack verify --deep out.bpk
brdfpack verify --json out.bpk | sed 's/"bytes_read": [0-9]*/"bytes_read": N/'
