# On a terminal extract shows how far it is, and removes the line; of one material it shows nothing.
fixture alpha beta gamma
build -q -o out.bpk .
python3 - <<'END'
import os, pty, subprocess
for names in ([], ["beta"]):
    master, slave = pty.openpty()
    code = subprocess.run([os.environ["BRDFPACK"], "extract", "-C", "to", "--force", "out.bpk"] + names, stderr=slave).returncode
    os.write(slave, b"end")
    shown = b""
    while not shown.endswith(b"end"):
        shown += os.read(master, 65536)
    print(code, b"/3 materials" in shown, shown.endswith(b"\r\x1b[Kend"), shown == b"end")
END
