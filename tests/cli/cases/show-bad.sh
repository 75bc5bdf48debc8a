# What cannot be shown or written: a message that says why, and no file.
fixture alpha beta
build -q -o out.bpk .
code brdfpack show -o a.pdf out.bpk alpha
code brdfpack show out.bpk alpha
code brdfpack show -o a.svg out.bpk
code brdfpack show --theta-h 5,91 -o a.svg out.bpk alpha
code brdfpack show --theta-h '' -o a.svg out.bpk alpha
code brdfpack show --profile best -o a.svg out.bpk alpha
code brdfpack show --measured nowhere -o a.svg out.bpk alpha
code brdfpack show -o missing/a.svg out.bpk alpha
code brdfpack show -o a.svg out.bpk gamma
code brdfpack show -o a.svg "$FIXTURES/unmeasured.binary"
code brdfpack show --profile spectral -o a.svg out.bpk alpha
code brdfpack show --measured alpha.binary -o a.svg alpha.binary
ls
# a folder with no file of that name: both names that were looked for
mkdir empty
code brdfpack show --measured empty -o a.svg out.bpk alpha
