# The commands, and what happens without one.
brdfpack help
code brdfpack
code brdfpack --help | tail -n 1
code brdfpack nonsense
code brdfpack help nonsense
code brdfpack help --help | tail -n 1
