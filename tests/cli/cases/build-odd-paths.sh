# FIFO, socket, device, dangling link, unreadable folder: named like inputs or given by name: refused, never a hang.
fixture alpha
mkfifo fifo.binary
ln -s nowhere dangling.binary
ln -s /dev/zero device.binary
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket.binary")'
mkfifo pipe
code build -o out.bpk .
code build -o named.bpk alpha.binary fifo.binary device.binary
brdfpack list out.bpk | cut -d ' ' -f 1
