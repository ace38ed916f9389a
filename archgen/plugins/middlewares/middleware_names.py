"""Names that three middlewares take alike: identifiers of C++ that are no words of IDL, where case does not tell names apart."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import find_name_clashes, make_camel_name, make_identifier_in, make_snake_name

IDL_KEYWORDS = frozenset(
    """
    abstract any attribute boolean case char component const consumes context custom default double emits enum eventtype
    exception factory false finder fixed float getraises home import in inout interface local long module multiple native
    object octet oneway out primarykey private provides public publishes raises readonly sequence setraises short string
    struct supports switch true truncatable typedef typeid typename typeprefix union unsigned uses valuebase valuetype void
    wchar wstring port porttype connector mirrorport
    """.split()  # noqa: SIM905 - a list of words
)
_MACROS = frozenset(
    """
    assert emit errno foreach i386 linux major makedev minor signals slots stderr stdin stdout unix signal environ
    """.split()  # noqa: SIM905
)
_TASK_NAMES = frozenset(
    """
    activate cleanup clear configure engine error exception getcpuaffinity getname getperiod infatalerror inexception
    inruntimeerror isactive isconfigured isrunning loadservice operations ports provides properties recover requires
    setcpuaffinity setperiod start state step stop this trigger update
    """.split()  # noqa: SIM905
)
"""What every component of Orocos has already, in small letters."""
_FILE_NAMES = frozenset(
    ("encoding", "library", "main", "plugin", "transport", "typekit", "serialization", "types", "values")
)
"""What the generators call files of their own, beside those of components."""
_HELPER_WORDS = ("behaviour", "servant")
"""How the classes end that stand beside those of components."""
_CLASS_NAMES = frozenset(
    """
    addinterface boolproperty configfile device doubleproperty driver inqueue intproperty main mainquit mainsetup message
    parameters peer preoperational processmessage processmessages publish queuepointer seterror stringproperty testcancel
    threadeddriver wait
    """.split()  # noqa: SIM905
)
"""What the code of components names without its namespace, in small letters."""
_OWN_SPACES = frozenset(("calls", "encoding", "services", "timed", "values"))
"""The namespaces that the generators make beside those of data."""
_MOST_WIRE = 40
_TAKEN_SPACES = frozenset(
    ("boost", "corba", "omniorb", "player", "posa", "posix", "rtc", "rtm", "rtt", "ocl", "coil", "sdopackage")
)


def name_member(name: str) -> str:
    """Return a name as fields, parameters and arguments have it: `max_speed`."""
    member = make_identifier_in("cpp", make_snake_name(name))
    return f"{member.rstrip('_')}_" if member in IDL_KEYWORDS | _MACROS else member


def name_port_member(name: str) -> str:
    """Return a name as ports and operations of components have it, which come with names of their own."""
    member = name_member(name)
    return f"{member}_" if member in _TASK_NAMES else member


def name_inside(name: str, outer_name: str) -> str:
    """Return a name as what stands inside of something can have it: IDL wants another one than around it."""
    return f"{name.rstrip('_')}_value" if name.casefold() == outer_name.casefold() else name


def make_class_name(words: str) -> str:
    """Return a name as classes and records have it: `LaserScan`."""
    name = make_camel_name(words)
    return f"{name}_" if name.casefold() in IDL_KEYWORDS else name


def name_component_class(words: str) -> str:
    """Return a name as classes of components have it: other than all that is made beside them."""
    name = make_class_name(words)
    return f"{name}_" if name.casefold() in _CLASS_NAMES or name.casefold().endswith(_HELPER_WORDS) else name


def name_component_files(words: str) -> str:
    """Return a name as the files of components begin: other than all that is made beside them."""
    name = name_member(words)
    return f"{name}_" if name in _FILE_NAMES or name.endswith(_HELPER_WORDS) else name


def name_data_space(package: str, outer_space: str) -> str:
    """Return a name as namespaces of data have it, which stand inside of that of the project."""
    space = name_space(package)
    return f"{space}_" if space == outer_space else space


def name_space(name: str) -> str:
    """Return a name as namespaces of C++ and modules of IDL have it."""
    space = name_member(name)
    return f"{space}_" if space in _TAKEN_SPACES | _OWN_SPACES else space


def shorten_wire_name(name: str) -> str:
    """Return a name with at most 40 characters: Player reads an address, of which it is a part, into 128 bytes."""
    if len(name) <= _MOST_WIRE:
        return name
    return f"{name[: _MOST_WIRE - 9]}_{hashlib.sha256(name.encode()).hexdigest()[:8]}"


def drop_clashes(names: Iterable[tuple[str, str, Span]], meaning: str) -> tuple[set[str], list[Diagnostic]]:
    """Return the elements whose name another one has, and what is said of them; `names` are as `find_name_clashes` has them."""
    findings = list(find_name_clashes(names, meaning))
    return {each.element or "" for each in findings}, findings
