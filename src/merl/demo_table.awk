# Turns manifests/demo.tsv into initialisers of struct demo_material, one per line (see demo.c).
# The header has to name the columns in this order, so that table and structure cannot drift apart.
BEGIN {
	FS = "\t"
	columns = "name kind diffuse specular roughness share specular2 roughness2 sheen retro retro_width coat coat_roughness film speckle edge reach noise"
	colour = " diffuse specular specular2 sheen retro "
	count = split(columns, column, " ")
}
NR == 1 {
	header = $0
	gsub(/\t/, " ", header)
	if (header != columns) {
		print FILENAME ": the header is not: " columns > "/dev/stderr"
		exit 1
	}
	next
}
/^#/ || /^$/ { next }
{
	if (NF != count) {
		print FILENAME ":" NR ": " NF " columns, expected " count > "/dev/stderr"
		exit 1
	}
	printf "{"
	for (n = 1; n <= count; n++) {
		if (column[n] == "kind") # for people
			continue
		value = $n
		if (n > 2 && value !~ /^[0-9][0-9.,]*$/) {
			print FILENAME ":" NR ": " column[n] ": not a number: " value > "/dev/stderr"
			exit 1
		}
		if (n == 1)
			value = "\"" value "\""
		else if (index(colour, " " column[n] " "))
			value = "{" value "}"
		printf "%s.%s = %s", (n > 1 ? ", " : ""), column[n], value
	}
	print "},"
}
