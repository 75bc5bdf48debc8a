# A folder or a file without permission to read it: the folder is skipped, the file refused, the others packed.
fixture alpha beta gamma
mkdir closed && mv beta.binary closed && chmod 000 closed gamma.binary
code unprivileged build --any-lattice -o out.bpk .
brdfpack list out.bpk | cut -d ' ' -f 1
