# bash completion for brdfpack: what the program's own help says, and the names in an archive that is on the line
_brdfpack() {
	local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} choices="" other
	COMPREPLY=()
	if [ "$COMP_CWORD" = 1 ]; then
		choices="help --help --version $("${COMP_WORDS[0]}" help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')"
	elif [[ $word == -* ]]; then
		choices=$("${COMP_WORDS[0]}" "$command" --help 2>/dev/null | sed -n 's/^ *\(-[a-zA-Z], \)\{0,1\}\(--[a-z-]*\).*/\1\2/p' | tr ',' ' ')
	elif [[ " list extract render report show subset " == *" $command "* ]]; then
		for other in "${COMP_WORDS[@]:2:COMP_CWORD-2}"; do
			[[ $other != *.bpk ]] || choices=$("${COMP_WORDS[0]}" list --json "$other" 2>/dev/null | sed -n 's/^{"name": "\([^"\\]*\)".*/\1/p')
		done
	fi
	# one a line: names may hold spaces
	while IFS= read -r other; do [[ -z $other || $other != "$word"* ]] || COMPREPLY+=("$other"); done < <(
		if [[ $choices == *$'\n'* && $word != -* && $COMP_CWORD != 1 ]]; then printf '%s\n' "$choices"; else printf '%s\n' $choices; fi)
}
complete -o default -F _brdfpack brdfpack
