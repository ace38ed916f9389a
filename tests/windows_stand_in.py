"""Takes away what Windows lacks, and lets files behave as they do there: `exec` this text, then run any program.

Modules, functions and signals of POSIX are gone; a file that is open, or may not be written, is neither replaced nor removed; a rename
replaces nothing; the folder in ARCHGEN_DRIVE is another drive; what is no terminal takes the letters of Windows-1252 only; processes of
Python that are started are treated alike, by ARCHGEN_STAND_IN, the path of this file. It is no Windows: paths have `/`, and names that
differ in case alone are two. `tests/test_windows_stand_in.py` says what is tried.
"""

from __future__ import annotations

import os
import select
import signal
import stat
import subprocess
import sys
import tempfile  # noqa: F401 - it looks at `os` while it is imported, and is to be that of POSIX

_THIS = os.environ["ARCHGEN_STAND_IN"]
_GONE_MODULES = ("fcntl", "grp", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty")
_GONE_FROM_OS = (
    "O_CLOEXEC O_DIRECTORY O_NOFOLLOW O_NONBLOCK O_SYNC chown fchown fork forkpty getegid geteuid getgid getgroups getloadavg getpgid "
    "getpgrp getuid killpg lchown mkfifo mknod nice pread pwrite sched_getaffinity setsid statvfs sync sysconf uname wait wait3 wait4"
)
_GONE_SIGNALS = "SIGALRM SIGCHLD SIGHUP SIGPIPE SIGPROF SIGQUIT SIGUSR1 SIGUSR2 SIGXCPU alarm pause pthread_sigmask setitimer sigwait"


def take_away() -> None:
    """Do all of it in this process, and in those of Python that it starts."""
    for name in _GONE_MODULES:
        sys.modules[name] = None  # type: ignore[assignment] # an import of it fails
    for module, names in ((os, _GONE_FROM_OS), (signal, _GONE_SIGNALS), (select, "epoll poll")):
        for name in names.split():
            vars(module).pop(name, None)
    for name, count in (("unlink", 1), ("remove", 1), ("replace", 2), ("rename", 2)):
        _guard(name, count)
    _part_drives(os.environ.get("ARCHGEN_DRIVE", ""))
    _treat_children()


def _guard(name: str, count: int) -> None:
    """Let a function of `os` fail as it does there; `count` are its paths."""
    real = getattr(os, name)

    def guarded(*arguments: str, **more: object) -> object:
        paths = [os.path.abspath(os.fspath(path)) for path in arguments[:count]]
        opened = set() if more else set(_list_open_files())  # with more, it is `shutil` that walks by descriptors
        for path in paths:
            if os.path.realpath(path) in opened:
                raise PermissionError(13, "the file is being used by another process", path)
        if os.path.isfile(paths[-1]) and not os.stat(paths[-1]).st_mode & stat.S_IWUSR:
            raise PermissionError(13, "access is denied", paths[-1])
        if name == "rename" and os.path.lexists(paths[-1]):
            raise FileExistsError(17, "a file that exists cannot be made", paths[-1])
        return real(*arguments, **more)

    setattr(os, name, guarded)


def _list_open_files() -> list[str]:
    opened = []
    for number in os.listdir("/proc/self/fd"):
        try:
            opened.append(os.readlink(f"/proc/self/fd/{number}"))
        except OSError:  # that of the listing itself
            continue
    return opened


def _part_drives(drive: str) -> None:
    """Let there be no way from one drive to another one."""
    real = os.path.relpath

    def find_way(path: str, start: str = os.curdir) -> str:
        places = [f"{os.path.abspath(os.fspath(each))}/" for each in (path, start)]
        if drive and len({place.startswith(f"{drive}/") for place in places}) > 1:
            message = f"path is on mount 'D:', start on mount 'C:': {places}"
            raise ValueError(message)
        return real(path, start)

    os.path.relpath = find_way  # type: ignore[assignment]


def _treat_children() -> None:
    start = subprocess.Popen.__init__

    def start_alike(process: subprocess.Popen[bytes], words: list[str], *more: object, **settings: object) -> None:
        words = list(words)
        if words[0] == sys.executable and "-c" in words:
            at = words.index("-c") + 1
            prelude = (
                f"import os; os.environ['ARCHGEN_STAND_IN'] = {_THIS!r}; exec(open({_THIS!r}, encoding='utf-8').read())"
            )
            words[at] = f"{prelude}\n{words[at]}"
        start(process, words, *more, **settings)  # type: ignore[call-overload]

    subprocess.Popen.__init__ = start_alike  # type: ignore[assignment,method-assign]


take_away()
