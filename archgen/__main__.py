"""The way in from the command line: run a verb, and never show a traceback."""

from __future__ import annotations

import gc
import os
import sys


def main() -> None:
    """Run the command line. Exit status: 0 no errors, 1 errors found, 2 wrong usage or a failure of the tool."""
    # A run is short, and what lives long in it holds no circles: looking for them again and again costs a fifth of it.
    gc.disable()
    import click

    from archgen.cli import main as verbs

    try:
        sys.exit(verbs.main(prog_name="archgen", standalone_mode=False))
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except (click.Abort, KeyboardInterrupt):
        sys.stderr.write("archgen: stopped\n")
        sys.exit(130)
    except BrokenPipeError:
        # Whoever read our output has had enough (`archgen list | head`): that is no failure.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
    except Exception as error:  # a traceback is never shown; ARCHGEN_DEBUG brings it back
        if os.environ.get("ARCHGEN_DEBUG"):
            raise
        what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        sys.stderr.write(f"archgen: failed: {what}\nThis is a mistake in archgen. ARCHGEN_DEBUG=1 shows where.\n")
        sys.exit(2)


if __name__ == "__main__":
    main()
