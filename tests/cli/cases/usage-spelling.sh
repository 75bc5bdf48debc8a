# Options are written out: a beginning that is unique today is another option's tomorrow. Commands get the nearest spelling.
code brdfpack lst x.bpk
code brdfpack xtract x.bpk
code brdfpack frobnicate
code brdfpack help veryfy
code brdfpack list --jso x.bpk
code brdfpack build --out x.bpk y
code brdfpack build --out=x.bpk y
code brdfpack build --budg 5000 -o x.bpk y
code brdfpack build --no -o x.bpk y
code brdfpack build --jbos 2 y
code brdfpack extract --fromat=bsdf x.bpk
code brdfpack list --zzz x.bpk
