# The parent killed outright: workers end, only a journal without records stays behind. A worker killed from outside: tried once more.
needs_hooks
fixture alpha beta gamma
build -o out.bpk alpha.binary && cp out.bpk before
cat >killed.py <<'END'
import os, signal, subprocess, time
def start(seconds, output):
    environment = dict(os.environ, BRDFPACK_TEST_SLEEP=seconds)
    build = subprocess.Popen([os.environ["BRDFPACK"], "build", "--any-lattice", "-j1", "-o", output, "."], env=environment)
    while True:
        children = open("/proc/%d/task/%d/children" % (build.pid, build.pid)).read().split()
        if children:
            return build, children
        time.sleep(0.01)
def gone(pid):
    try:
        return open("/proc/%s/stat" % pid).read().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True
build, children = start("10", "out.bpk")
build.kill()
build.wait()
for _ in range(2000):
    if all(map(gone, children)):
        break
    time.sleep(0.01)
print("workers left:", [c for c in children if not gone(c)])
build, children = start("1", "other.bpk")
time.sleep(0.2)
os.kill(int(children[0]), signal.SIGKILL)
print("exit", build.wait())
END
python3 killed.py
cmp out.bpk before && echo untouched
brdfpack list other.bpk | cut -d ' ' -f 1
ls -A
