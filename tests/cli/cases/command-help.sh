# Every command explains itself, in both ways alike.
for command in build list extract verify synth; do
	brdfpack $command --help >a && brdfpack help $command >b && cmp a b && head -n 1 a
done
