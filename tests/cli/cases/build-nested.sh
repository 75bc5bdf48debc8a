# A container within a container is named, not dropped; so is a file as large as a table under another name.
fixture alpha beta
tar cf inner.tar beta.binary && gzip -k beta.binary
python3 -m zipfile -c outer.zip alpha.binary inner.tar beta.binary.gz
tar czf outer.tar.gz alpha.binary inner.tar beta.binary.gz
code build -o zip.bpk outer.zip
code build -o tar.bpk outer.tar.gz
cmp zip.bpk tar.bpk
code build --json -o json.bpk outer.tar.gz 2>/dev/null | grep -o '"path": "[^"]*", "error": "[^;]*'
echo alpha >list && code build -o listed.bpk --manifest list outer.tar.gz
echo nonsense | gzip -c >text.tar.gz
code build -o text.bpk alpha.binary text.tar.gz
mkdir big && cp alpha.binary big && truncate -s 34992012 big/beta.brdf
code build -o big.bpk big
code build --json -q -o big.bpk big | grep -o '"warning": .*'
