# Output that cannot be written is an error, whatever the reason.
brdfpack --version >&- || echo "closed: exit $?"
brdfpack --version >/dev/full || echo "full: exit $?"
mkfifo pipe
{ sleep 0.2; brdfpack --version; echo "pipe: exit $?" >pipe.code; } >pipe &
exec 3<pipe 3<&-
wait
cat pipe.code
