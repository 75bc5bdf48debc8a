# A text file as a C string constant: awk -v name=NAME -f text_to_c.awk FILE
BEGIN { printf "static const char %s[] =\n", name }
{ gsub(/\\/, "\\\\"); gsub(/"/, "\\\""); gsub(/\t/, "\\t"); printf "\t\"%s\\n\"\n", $0 }
END { print "\t;" }
