"""Commands `boatsim` as forks of one process that has imported the package.

A tutorial has up to 19 commands, and the imports of each take 1.3 s of CPU time. Here the program
`boatsim` on the PATH only sends its arguments, working folder, environment and open files to a
server. The server has the imported modules and forks: the fork has the arguments, folder,
environment and files of the command, runs the command line as any other process does, and its exit
code becomes that of the program.
"""

import contextlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

# The program on the PATH; it imports nothing that takes long.
CLIENT = """#!{python} -IS
import json, os, socket, sys
connection = socket.socket(socket.AF_UNIX)
connection.connect({address!r})
request = {{"arguments": sys.argv[1:], "folder": os.getcwd(), "environment": dict(os.environ)}}
socket.send_fds(connection, [b"b"], [0, 1, 2])
connection.sendall(json.dumps(request).encode() + b"\\n")
answer = connection.recv(1)
sys.exit(answer[0] if answer else 70)
"""
# What most commands import when they are called.
MODULES = (
    "boatsim.cli.commands",
    "boatsim.diagnosis.pipeline",
    "boatsim.newboat",
    "boatsim.recordings.importing",
    "boatsim.simulate.run",
    "boatsim.simulate.run_files",
    "boatsim.sweeps",
)


@contextlib.contextmanager
def forked_commands(environment: Mapping[str, str]) -> Iterator[Path]:
    """Start a server within a `with` block.

    Args:
        environment: Environment of the server while it imports the package.

    Yields:
        Folder with the program `boatsim`, for the beginning of a PATH.
    """
    with tempfile.TemporaryDirectory() as folder:
        program, address = Path(folder, "boatsim"), str(Path(folder, "socket"))
        program.write_text(CLIENT.format(python=sys.executable, address=address))
        program.chmod(0o755)
        command = [sys.executable, "-P", __file__, address]
        with subprocess.Popen(
            command, env=dict(environment), stdout=subprocess.PIPE, text=True
        ) as server:
            try:
                assert server.stdout is not None and server.stdout.readline() == "ready\n"
                yield Path(folder)
            finally:
                server.terminate()


def serve(address: str) -> None:
    """Answer programs until the process is ended; return in each fork that is to run a command.

    Args:
        address: Path of the socket.
    """
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(address)
    listener.listen()
    print("ready", flush=True)
    while True:
        connection, _ = listener.accept()
        while _reap_one():
            pass
        if os.fork() == 0:
            listener.close()
            if _is_command(connection):
                return
            os._exit(0)
        connection.close()


def _reap_one() -> bool:
    """Collect one fork that has ended; return whether there was one."""
    with contextlib.suppress(ChildProcessError):
        return os.waitpid(-1, os.WNOHANG)[0] != 0
    return False


def _is_command(connection: socket.socket) -> bool:
    """Fork once more, and return True in the fork that is to run the command.

    The other fork waits, sends the exit code, and returns False. If the program was killed in the
    meantime, it kills the command.
    """
    _, files, _, _ = socket.recv_fds(connection, 1, 3)
    with connection.makefile("rb") as stream:
        request = json.loads(stream.readline())
    command = os.fork()
    if command == 0:
        connection.close()
        _become(request, files)
        return True
    for file in files:
        os.close(file)
    ended = os.pidfd_open(command)
    ready, _, _ = select.select([connection, ended], [], [])
    if ended not in ready:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(command, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(os.waitpid(command, 0)[1])
    if code < 0:  # killed by a signal, in the way of shells
        code = 128 - code
    with contextlib.suppress(OSError):
        connection.sendall(bytes([code]))
    return False


def _become(request: Mapping[str, Any], files: list[int]) -> None:
    """Take arguments, folder, environment and open files of the program that asked."""
    os.setsid()
    for number, file in enumerate(files):
        os.dup2(file, number)
        os.close(file)
    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    sys.argv = ["boatsim", *request["arguments"]]
    # The streams of the server know the kind of its own files.
    sys.stdin = open(0, closefd=False)
    sys.stdout = open(1, "w", closefd=False)
    sys.stderr = open(2, "w", buffering=1, errors="backslashreplace", closefd=False)
    sys.__stdin__, sys.__stdout__, sys.__stderr__ = sys.stdin, sys.stdout, sys.stderr


if __name__ == "__main__":
    for name in MODULES:
        import_module(name)
    # A fork has only the thread that called it.
    assert len(os.listdir("/proc/self/task")) == 1, "an imported module has started a thread"
    serve(sys.argv[1])
    import_module("boatsim.__main__").main()
