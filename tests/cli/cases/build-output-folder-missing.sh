# The output's folder does not exist, or is a file: an error that names the path.
fixture alpha
code build -o no/such/out.bpk alpha.binary
code build -o alpha.binary/out.bpk alpha.binary
mkdir folder
code build -o folder alpha.binary
ls -A . folder
