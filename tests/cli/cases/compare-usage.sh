# Wrong command lines: exit code 2 and a message, nothing done.
code brdfpack compare
code brdfpack compare out.bpk
code brdfpack compare --size 0 out.bpk .
code brdfpack compare --size 100000 out.bpk .
code brdfpack compare --light sun out.bpk .
code brdfpack compare -j 0 out.bpk .
code brdfpack compare missing.bpk .
