# FIFO, socket, device, dangling link, unreadable folder: a warning, skipped, never a hang.
fixture alpha
mkfifo fifo.binary
ln -s nowhere dangling.binary
ln -s /dev/zero device.binary
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket.binary")'
code build -o out.bpk .
code build -o named.bpk alpha.binary fifo.binary device.binary
brdfpack list out.bpk | cut -d ' ' -f 1
