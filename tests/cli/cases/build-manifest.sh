# Only the listed materials are packed, and what is missing is reported.
fixture alpha beta gamma
printf '# list\nalpha\ngamma\n' >two.txt
code build --manifest two.txt -o two.bpk .
brdfpack list two.bpk | cut -d ' ' -f 1
printf 'name\tbytes\nalpha\t6924\ndelta\t\nbeta\t6925\n' >three.tsv
code build --manifest three.tsv -o three.bpk .
brdfpack list three.bpk | cut -d ' ' -f 1
code build --strict --manifest three.tsv -o strict.bpk .
tar czf all.tar.gz ./*.binary
code build --manifest two.txt -o stream.bpk all.tar.gz
cmp two.bpk stream.bpk && echo same
ls strict.bpk 2>/dev/null
