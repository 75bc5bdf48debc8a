# SIGHUP, SIGINT and SIGTERM: the workers stop, no temporary file stays, exit 129, 130 and 143, the old archive is untouched.
needs_hooks
fixture alpha beta gamma
build -o out.bpk alpha.binary && cp out.bpk before
cat >interrupt.py <<'END'
import os, signal, subprocess, sys, time
for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
    environment = dict(os.environ, BRDFPACK_TEST_SLEEP="10")
    build = subprocess.Popen([os.environ["BRDFPACK"], "build", "--any-lattice", "-j2", "-o", "out.bpk", "."],
                             env=environment, start_new_session=True)
    def workers():
        return open("/proc/%d/task/%d/children" % (build.pid, build.pid)).read().split()
    while len(workers()) < 2:
        time.sleep(0.01)
    time.sleep(0.1)
    children = workers()
    if number == signal.SIGINT:
        os.killpg(build.pid, number)   # as a terminal does: to everyone
    else:
        build.send_signal(number)
    print("exit", build.wait(timeout=30))
    print("workers left:", sum(os.path.exists("/proc/" + child) for child in children))
END
python3 interrupt.py
cmp out.bpk before && echo untouched
ls -A
