"""Does archgen know the ROS distribution that the project is for?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.suggestions import did_you_mean
from archgen.model.known_interfaces import KNOWN_DISTROS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture


def unknown_distro(architecture: Architecture) -> Iterator[Diagnostic]:
    """The project is for a ROS distribution of which archgen holds no interfaces.

    Why: No message, service or action is checked then, but for those that the project defines itself. Most often it is a
    slip in the name.

    Bad:
        ros: {distro: jazy}

    Good:
        ros: {distro: jazzy}
    """
    distro = architecture.distro
    if distro is not None and distro not in KNOWN_DISTROS:
        known_distros = f"archgen holds the interfaces of {', '.join(sorted(KNOWN_DISTROS))}"
        yield Diagnostic(
            "unknown-distro",
            f"archgen holds no interfaces of `{distro}`: no message is checked",
            architecture.distro_at,
            help=did_you_mean(distro, KNOWN_DISTROS) or known_distros,
        )


RULES = ((unknown_distro, Severity.WARNING),)
