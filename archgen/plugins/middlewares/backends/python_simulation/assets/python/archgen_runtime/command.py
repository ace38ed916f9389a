"""Run an architecture from the command line."""

import argparse
import sys
from pathlib import Path

from .errors import SimulationError
from .scenario import apply_scenario, read_time
from .simulation import Simulation


def run_command(assembly, words=None):
    """Run what `assembly` makes, print the trace, and return the exit status.

    It is 1 if the run went wrong.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("scenario", nargs="?")
    parser.add_argument("--until", default="1s")
    options = parser.parse_args(words)
    try:
        simulation = Simulation(assembly(), sys.stdout)
        if options.scenario is not None:
            text = Path(options.scenario).read_bytes().decode("utf-8")
            apply_scenario(text, options.scenario, simulation)
        simulation.run(read_time(options.until))
    except SimulationError as error:
        sys.stdout.flush()
        print(error, file=sys.stderr)
        return 1
    except (OSError, UnicodeDecodeError) as error:
        print(f"cannot read or write: {error}", file=sys.stderr)
        return 1
    return 0
