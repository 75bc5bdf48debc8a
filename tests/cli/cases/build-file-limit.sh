# A limit on files' sizes (ulimit -f, SIGXFSZ): a message, and nothing half-written.
fixture alpha beta
ulimit -f 1
code build -o out.bpk . 2>err
sed 's/brdfpack: //' err | tail -n 2
ls -A | grep -v binary
