# Without --any-lattice only MERL's own extents are accepted.
fixture alpha
code brdfpack build -o out.bpk alpha.binary
ls
