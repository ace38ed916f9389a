"""What archgen has beside its code: files that ship with it (schemas, backends, examples), and what workers may see."""

from __future__ import annotations

import os
from pathlib import Path

SWITCH_VARIABLE = "ARCHGEN_NO_PLUGINS"
"""Set to anything: no plug-ins of others. `--no-plugins` sets it, so that worker processes see it, too."""
REPOSITORY = "archgen/archgen"
"""Where archgen will be published on GitHub: the one place for this name, from which every other is made or tested."""
HOME_URL = f"https://github.com/{REPOSITORY}"
_WORKER_VARIABLES = (
    # Where this interpreter found its modules, the libraries of Graphviz and XML among them, a worker finds them, too.
    *("PYTHONPATH", "PYTHONHOME"),
    # Where it found shared libraries: on Linux, on macOS, and on Windows.
    *("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "DYLD_FALLBACK_LIBRARY_PATH", "SYSTEMROOT"),
    # Where plug-ins of others are switched off, they are so in workers.
    SWITCH_VARIABLE,
)
"""What an interpreter needs to start, to find its libraries and to judge as this one did; nobody keeps a secret in them."""
_PACKAGE_FOLDER = Path(__file__).resolve().parent


def resource_root() -> Path:
    """Return the folder with `schemas/`, `backends/`, `docs/rules/`, `start/`, `ros_library/`, `ros_type_mapper.yaml` and `example_ramcip/`.

    It is `archgen/_data` in an installed wheel, and the top of the repository in a checkout.
    """
    data_folder = _PACKAGE_FOLDER / "_data"
    return data_folder if data_folder.is_dir() else _PACKAGE_FOLDER.parent


def resource_path(*path_parts: str) -> Path:
    """Return the path of a shipped file or folder."""
    return resource_root().joinpath(*path_parts)


def worker_environment(*further_variables: str) -> dict[str, str]:
    """Return the environment of a worker process: what its interpreter needs, and the variables that are named here.

    A job's environment holds secrets, and a worker reads what strangers wrote.
    """
    return {name: os.environ[name] for name in (*_WORKER_VARIABLES, *further_variables) if name in os.environ}
