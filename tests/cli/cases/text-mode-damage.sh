# An archive that was carried as text is recognised as damaged.
fixture alpha
build -o out.bpk .
sed 's/\r$//' out.bpk >unix.bpk
code brdfpack list unix.bpk
