# Help fits a terminal of 80 columns, and no word is lost or broken on the way.
for command in $(brdfpack help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
	brdfpack $command --help >text
	awk -v command="$command" 'length > 80 {print command ": " $0}' text
	grep -q "^Usage: " text || echo "$command: no usage"
done
brdfpack help | awk 'length > 80'
brdfpack list --help
brdfpack show --help
