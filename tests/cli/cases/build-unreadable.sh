# A folder or a file without permission to read it.
[ "$(id -u)" != 0 ] || { echo "skip: root may read everything"; exit; }
fixture alpha beta
mkdir closed && mv beta.binary closed && chmod 000 closed
code build -o out.bpk .
chmod 700 closed
