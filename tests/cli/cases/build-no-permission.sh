# An output folder that is not writable.
[ "$(id -u)" != 0 ] || { echo "skip: root may write everywhere"; exit; }
fixture alpha
mkdir closed && chmod 500 closed
code build -o closed/out.bpk alpha.binary
