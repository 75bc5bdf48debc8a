# An output folder that is not writable: an error that names the path, before any work.
fixture alpha
mkdir closed && chmod 555 closed
code unprivileged build --any-lattice -o closed/out.bpk alpha.binary
ls -A closed
