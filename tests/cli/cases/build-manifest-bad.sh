# A manifest that cannot be read: the line is named, nothing is packed.
fixture alpha
printf 'alpha\nbe/ta\n' >bad.txt
code build --manifest bad.txt -o out.bpk .
printf 'alpha\nalpha\n' >twice.txt
code build --manifest twice.txt -o out.bpk .
code build --manifest missing.txt -o out.bpk .
code build --manifest . -o out.bpk .
ls *.bpk 2>/dev/null
