# Without a terminal a build that goes well says nothing.
fixture alpha beta
build -o out.bpk . && ls
