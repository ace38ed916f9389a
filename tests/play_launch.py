"""`play_launch`, a program of others that resolves and starts launch files of ROS 2, in an environment of its own.

The official launch is not on PyPI. It wants Python 3.10's library, and two libraries of messages that no wheel has: it links them
for what containers load, which is not started here, so that empty ones do.
"""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

from tests.outside_tools import run_judge
from tests.ros_environment import ROS_FOLDER, ros_environment
from tests.running import ROOT

FOLDER = ROOT / ".make" / "play_launch"
_VERSION = "0.16.0"
_MESSAGES = ("ListNodes_Request", "ListNodes_Response", "LoadNode_Response", "UnloadNode_Response")
_SERVICES = ("ListNodes", "LoadNode", "UnloadNode")


def find_python_library() -> Path | None:
    """Return the folder of Python 3.10's library, where pyenv or the system has one."""
    pyenv = Path(os.environ.get("PYENV_ROOT", str(Path.home() / ".pyenv")))
    folders = [*sorted(pyenv.glob("versions/3.10.*/lib")), Path("/usr/lib/x86_64-linux-gnu"), Path("/usr/lib64")]
    return next((each for each in folders if (each / "libpython3.10.so.1.0").exists()), None)


def make_play_launch() -> Path:
    """Return the program; it is made where it is not there yet."""
    done = FOLDER / "installed"
    FOLDER.parent.mkdir(exist_ok=True)
    with (FOLDER.parent / "play_launch.lock").open("w") as lock:
        # Several workers ask for it at once.
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not done.exists() or done.read_text() != _VERSION:
            run_judge(sys.executable, "-m", "venv", "--clear", str(FOLDER))
            pip = [str(FOLDER / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
            run_judge(*pip, f"play_launch=={_VERSION}")
            _make_empty_libraries()
            done.write_text(_VERSION)
    return _find_package() / "bin" / "play_launch"


def _make_empty_libraries() -> None:
    prefix = "composition_interfaces__srv__"
    names = [f"{prefix}{each}__init" for each in _MESSAGES]
    handle = "rosidl_typesupport_c__get_service_type_support_handle__"
    names += [f"{handle}{prefix}{each}" for each in _SERVICES]
    source = FOLDER / "empty.c"
    source.write_text("void abort(void);\n" + "".join(f"void {name}(void) {{ abort(); }}\n" for name in names))
    for kind in ("generator_c", "typesupport_c"):
        library = FOLDER / f"libcomposition_interfaces__rosidl_{kind}.so"
        run_judge("cc", "-shared", "-fPIC", "-o", str(library), str(source))


def _find_package() -> Path:
    (package,) = FOLDER.glob("lib/python3.*/site-packages/play_launch")
    return package


def play_environment(domain: int, log_folder: Path, prefix: Path, python_path: Path) -> dict[str, str]:
    """Return the variables of `play_launch` for packages that are installed below a prefix."""
    libraries = [
        FOLDER,
        ROS_FOLDER / "lib",
        _find_package() / "lib",
        find_python_library() or Path(),
        *sorted(ROS_FOLDER.glob("lib/python3.*/site-packages/ros_*.libs")),
    ]
    return ros_environment(domain, log_folder) | {
        "AMENT_PREFIX_PATH": f"{prefix}:{ROS_FOLDER}",
        "LD_LIBRARY_PATH": ":".join(str(each) for each in libraries),
        "PYTHONPATH": str(python_path),
    }


def install_packages(source: Path, prefix: Path) -> None:
    """Install generated packages as `colcon build` does: programs below lib/, what is shared below share/, an index."""
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    for package in source.iterdir():
        (index / package.name).touch()
        share = prefix / "share" / package.name
        share.parent.mkdir(exist_ok=True)
        subprocess.run(["cp", "-r", str(package), str(share)], check=True)  # noqa: S603, S607 - our own files
        for node in package.glob(f"{package.name}/*_node.py"):
            program = prefix / "lib" / package.name / node.stem.removesuffix("_node")
            program.parent.mkdir(parents=True, exist_ok=True)
            python = ROS_FOLDER / "bin" / "python"
            program.write_text(f"#!{python}\nfrom {package.name}.{node.stem} import main\nmain()\n")
            program.chmod(0o755)
