"""Does archgen know the ROS distribution that the project is for?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.model.known_interfaces import KNOWN_DISTROS, guess_distro
from archgen.model.ros_distro import PAST_DISTROS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture


def unknown_distro(architecture: Architecture) -> Iterator[Diagnostic]:
    """The project is for a ROS distribution of which archgen holds no interfaces."""
    distro = architecture.distro
    if distro is None or distro in KNOWN_DISTROS:
        return
    meant_distro = guess_distro(distro)
    if meant_distro != distro:
        message = f"no ROS distribution is called `{distro}`: messages are checked as of `{meant_distro}`"
        help_line = f"did you mean `{meant_distro}`?"
    else:
        message = f"archgen holds no interfaces of `{distro}`: no message is checked"
        help_line = f"archgen holds the interfaces of {', '.join(sorted(KNOWN_DISTROS))}"
    severity = Severity.WARNING if distro in PAST_DISTROS else None
    yield Diagnostic("unknown-distro", message, architecture.distro_at, help=help_line, severity=severity)


RULES = ((unknown_distro, Severity.ERROR),)
