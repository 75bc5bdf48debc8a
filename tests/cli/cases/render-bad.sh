# What cannot be rendered or written: a message that says why, and no file.
fixture alpha
build -q -o out.bpk .
code brdfpack render --size 0 -o a.png out.bpk alpha
code brdfpack render --size 100000 -o a.png out.bpk alpha
code brdfpack render --light sun -o a.png out.bpk alpha
code brdfpack render -o a.jpg out.bpk alpha
code brdfpack render out.bpk alpha
code brdfpack render -o a.png
code brdfpack render -o a.png out.bpk
code brdfpack render -o a.png out.bpk alhpa
code brdfpack render -o a.png out.bpk alpha beta
code brdfpack render -o missing/a.png out.bpk alpha
code brdfpack render -o a.png "$FIXTURES/unmeasured.binary"
code brdfpack render -o a.png nowhere.binary
code brdfpack render -o a.png alpha.binary beta
ls
