"""Names of classes in Java: which are taken, and how a file names those of other packages."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

# What generated files name without a package: those of java.lang, of java.util, and of archgen's own classes.
JAVA_CLASS_NAMES = frozenset(
    """
    Appendable ArithmeticException Assembly Boolean Byte CharSequence Character Class Client Collections Command Comparable
    Component Consumer Deprecated Double Enum Error Exception Float FunctionalInterface IllegalArgumentException
    IllegalStateException InPort Integer Iterable Json List Long Main Map Math Module Named NullPointerException Number Object
    Optional OutPort Override Package ParameterCheck Parameters Port Process Record Runnable Runtime RuntimeException
    SafeVarargs Scenario Server Set Short Simulation SimulationException String StringBuilder SuppressWarnings System Thread
    Throwable Timing Values Void
    """.split()  # noqa: SIM905 - a list of words
)
"""A class of the model with such a name gets another one: it would stand for the library's in all files of its package."""


def choose_java_spellings(names: Mapping[str, str], package: str, own_names: Iterable[str]) -> dict[str, str]:
    """Return how a file in a package names classes, given by their full names: by the last word, where only one has it.

    A class that is named by its last word is imported, unless it stands in the same package. `own_names` mean something
    else in the file.
    """
    counts = Counter(_get_last_word(each) for each in dict.fromkeys(names.values()))
    taken = JAVA_CLASS_NAMES.union(own_names)
    spellings: dict[str, str] = {}
    for key, full_name in names.items():
        word = _get_last_word(full_name)
        means_another = word in taken and full_name != f"{package}.{word}"
        spellings[key] = full_name if means_another or counts[word] > 1 else word
    return spellings


def _get_last_word(full_name: str) -> str:
    return full_name.rpartition(".")[2]
