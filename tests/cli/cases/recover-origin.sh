# What recover saves is whole for verify: whether a section says something that is known is asked by --deep alone.
cp "$(dirname "$0")/../../../format-spec/vectors/bad-origin.bpk" .
brdfpack recover -o out.bpk bad-origin.bpk
brdfpack verify out.bpk
brdfpack verify --deep out.bpk
