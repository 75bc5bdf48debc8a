# Help fits a terminal of 80 columns, and no word is lost or broken on the way.
for command in $(brdfpack help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
	brdfpack $command --help >text
	echo "$command: $(awk 'length > 80' text | wc -l) lines too long, $(grep -c '^Usage: ' text) usage"
done
brdfpack help | awk 'length > 80'
brdfpack list --help
brdfpack show --help
