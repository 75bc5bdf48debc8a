# The version on standard output.
brdfpack --version
