"""The entry point of the command line: run a command, and never show a traceback."""

from __future__ import annotations

import gc
import io
import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:  # as type checkers read it, without loading `typing`
    from archgen.cache.kept_runs import RunKeeper


def main() -> None:
    """Run the command line. Exit status: 0 no errors, 1 errors found, 2 wrong usage or a failure, 130 and more stopped."""
    # All of it is inside: imports take most of the first tenth of a second, in which people press Ctrl-C, too.
    try:
        _take_ending_signals()
        _run_verb()
    except KeyboardInterrupt as stop:
        sys.stderr.write("archgen: stopped\n")
        sys.exit(stop.args[0] if stop.args else 130)
    except BrokenPipeError:
        # The reader of our output has closed it (`archgen list | head`): that is not a failure.
        _leave_quietly()
        sys.exit(0)
    except OSError as error:  # a full disk behind the output, for instance
        _leave_quietly()
        sys.stderr.write(
            f"archgen: failed: {error.strerror or error}{f': {error.filename}' if error.filename else ''}\n"
        )
        sys.exit(2)
    except Exception as error:  # a traceback is never shown; ARCHGEN_DEBUG brings it back
        if os.environ.get("ARCHGEN_DEBUG"):
            raise
        error_text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        sys.stderr.write(f"archgen: failed: {error_text}\nThis is a mistake in archgen. ARCHGEN_DEBUG=1 shows where.\n")
        sys.exit(2)


def _take_ending_signals() -> None:
    """Let signals that would end the process at once (`kill`, a terminal that is closed) stop it as Ctrl-C does.

    So what is half done is taken away.
    """
    import signal

    def stop(number: int, _: object) -> None:
        raise KeyboardInterrupt(128 + number)

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number and signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, stop)


def _run_verb() -> None:
    # A run is short, and its long-lived objects (trees, models) form no cycles: searching them for garbage again and
    # again costs a fifth of the run.
    gc.disable()
    _prepare_streams()
    keeper = _start_keeping()
    import click

    from archgen.cli import main as verbs
    from archgen.diagnostics import make_visible
    from archgen.installed_plugins import PluginRefusedError

    try:
        try:
            sys.exit(verbs.main(prog_name="archgen", standalone_mode=False))
        except SystemExit as end:
            if keeper:
                keeper.keep(end.code)
            raise
        finally:
            if keeper:
                keeper.stop_noting()
            # At its end Python looks through all objects for garbage, whether or not it did so before: a tenth of a check.
            gc.freeze()
            sys.stdout.flush()  # here, so that a closed pipe or a full disk is still handled by the caller
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except PluginRefusedError as error:
        sys.stderr.write(f"Error: {make_visible(str(error))}\n")
        sys.exit(2)
    except click.Abort as abort:
        raise (abort.__cause__ if isinstance(abort.__cause__, KeyboardInterrupt) else KeyboardInterrupt) from None


def _prepare_streams() -> None:
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # the caller closed it: discard what is written
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115, PTH123 - until the process ends
    if isinstance(sys.stdout, io.TextIOWrapper):
        if sys.platform == "win32" and not sys.stdout.isatty():
            sys.stdout.reconfigure(encoding="utf-8")  # whoever reads a pipe or file there reads JSON, CSV, YAML
        sys.stdout.reconfigure(errors="replace")  # where it is not UTF-8: a question mark instead of no output at all


def _start_keeping() -> RunKeeper | None:
    """Say what an earlier run said, and end, where it would be the same again; return what keeps this one otherwise."""
    # Where it is not POSIX, nothing tells when a file changed, whatever date it was given. From Python 3.13 on
    # `Path.glob` asks past the functions that are watched.
    if not hasattr(os, "geteuid") or sys.version_info >= (3, 13):
        return None
    from archgen.cache import KEPT_VERBS

    if not {*sys.argv[1:2]} & {*KEPT_VERBS}:
        return None
    from archgen.cache.kept_runs import RunKeeper

    keeper = RunKeeper(sys.argv[1:], _ask_git)
    status = keeper.repeat()
    if status is not None:
        sys.exit(status)
    keeper.start_noting()
    return keeper


def _ask_git(folder: str, arguments: list[str]) -> object:
    from archgen.git.git_call import ask_git

    return ask_git(folder, arguments)


def _leave_quietly() -> None:
    """Discard what is still buffered, so that Python's own flush at exit prints no error."""
    # `contextlib` is imported here: it would lengthen the time in which nothing catches an interrupt.
    import contextlib

    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    # `python -m archgen` puts the current folder first: a file of the project would be imported in place of a library.
    if not sys.flags.safe_path:
        del sys.path[0]
    main()
