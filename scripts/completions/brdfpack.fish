# fish completion for brdfpack: what the program's own help says
function __brdfpack_commands
    brdfpack help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1\t\2/p'
end
function __brdfpack_options
    set -l words (commandline -opc)
    brdfpack $words[2] --help 2>/dev/null | sed -n 's/^ *\(-[a-zA-Z], \)\{0,1\}\(--[a-z-]*\)\( [A-Z.a-z]*\)\{0,1\}  *\(.*\)/\2\t\4/p'
end
complete -c brdfpack -n __fish_use_subcommand -f -a '(__brdfpack_commands)'
complete -c brdfpack -n 'not __fish_use_subcommand' -a '(__brdfpack_options)'
