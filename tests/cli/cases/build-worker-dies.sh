# A worker that dies is replaced and its material tried once more, then reported with its signal.
needs_hooks
fixture alpha beta gamma
BRDFPACK_TEST_CRASH=beta:1 code build -j2 -o once.bpk .
brdfpack list once.bpk | cut -d ' ' -f 1
BRDFPACK_TEST_CRASH=beta code build -j2 -o twice.bpk .
brdfpack list twice.bpk | cut -d ' ' -f 1
tar czf all.tar.gz ./*.binary
BRDFPACK_TEST_CRASH=beta:1 code build -o stream.bpk all.tar.gz
cmp once.bpk stream.bpk && echo same
