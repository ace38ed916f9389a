"""The profile of Fast DDS with which the processes of a host are started: what of `discovery: peers` no variable of ROS says."""

from __future__ import annotations

import ipaddress
from xml.sax.saxutils import escape

from archgen.derivation.wire.running_state import list_peers
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.ros_distro import PAST_DISTROS, can_name_peers, is_ros_1

_LOOPBACK = "127.0.0.1"
_FAST_DDS = "rmw_fastrtps"
_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
"""Of Fast DDS 2, and of Fast DDS 3, which ROS has since Kilted."""
_OWN_WORDS = frozenset({*_VARIABLES, "ROS_DISCOVERY_SERVER"})
"""Variables by which a project says itself how its DDS finds others."""


@dataclass(frozen=True, slots=True)
class DdsProfile:
    """A file that a variable of the environment names: the interfaces that DDS uses, and whom it asks for others."""

    variable: str
    interfaces: tuple[str, ...] = ()
    """Their addresses; none where it may use all."""
    peers: tuple[str, ...] = ()
    """None where a variable of ROS names them."""

    def write_xml(self) -> str:
        """Return the text of the file."""
        interfaces = "".join(f"\n          <address>{escape(each)}</address>" for each in self.interfaces)
        peers = "".join(
            f"\n            <locator><udpv4><address>{escape(each)}</address></udpv4></locator>" for each in self.peers
        )
        white_list = f"\n        <interfaceWhiteList>{interfaces}\n        </interfaceWhiteList>" if interfaces else ""
        builtin = f"\n        <builtin>\n          <initialPeersList>{peers}\n          </initialPeersList>\n        </builtin>"
        return _PROFILE.format(white_list=white_list, builtin=builtin if peers else "")


_PROFILE = """\
<?xml version="1.0" encoding="UTF-8"?>
<!-- Which interfaces DDS uses, and whom it asks for others: from hosts, addresses and links. Made by archgen. -->
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <profiles>
    <transport_descriptors>
      <transport_descriptor>
        <transport_id>links_of_host</transport_id>
        <type>UDPv4</type>
        <maxInitialPeersRange>100</maxInitialPeersRange>{white_list}
      </transport_descriptor>
      <transport_descriptor>
        <transport_id>memory_of_host</transport_id>
        <type>SHM</type>
      </transport_descriptor>
    </transport_descriptors>
    <participant profile_name="host" is_default_profile="true">
      <rtps>{builtin}
        <userTransports>
          <transport_id>links_of_host</transport_id>
          <transport_id>memory_of_host</transport_id>
        </userTransports>
        <useBuiltinTransports>false</useBuiltinTransports>
      </rtps>
    </participant>
  </profiles>
</dds>
"""


def find_dds_profile(architecture: Architecture, host_id: str | None) -> DdsProfile | None:
    """Return the profile of a host; None where nothing is to be said, the project says it itself, or its DDS is another one."""
    host = architecture.hosts.get(host_id or "")
    if host is None or architecture.ros_discovery != "peers" or is_ros_1(architecture.distro):
        return None
    written = {each.name: str(each.value) for each in architecture.ros_environment} | dict(host.environment)
    if not written.get("RMW_IMPLEMENTATION", _FAST_DDS).startswith(_FAST_DDS) or not _OWN_WORDS.isdisjoint(written):
        return None
    # It takes no peer by a number of IPv6, as `archgen check` says.
    others = (each for each in list_peers(architecture, host.id) if ":" not in each)
    peers = () if can_name_peers(architecture.distro) else tuple(dict.fromkeys((_LOOPBACK, *others)))
    networks = [each for each in architecture.links.values() if host.id in each.connects and len(each.connects) > 1]
    # Its one address is that of one network: of a second one nobody says which interface it is.
    interfaces = (_LOOPBACK, host.network_name) if len(networks) <= 1 and _names_interface(host.network_name) else ()
    is_second = architecture.distro in PAST_DISTROS | {"humble", "jazzy"}
    return DdsProfile(_VARIABLES[0 if is_second else 1], interfaces, peers) if interfaces or peers else None


def record_dds_profile(architecture: Architecture, host_id: str | None) -> dict[str, str] | None:
    """Return the variable that names the profile of a host, and its text, for templates."""
    profile = find_dds_profile(architecture, host_id)
    return {"variable": profile.variable, "text": profile.write_xml()} if profile else None


def _names_interface(address: str) -> bool:
    """Whether an address is the number of one interface through which others are reached."""
    try:
        number = ipaddress.IPv4Address(address)
    except ValueError:
        return False
    return not (number.is_loopback or number.is_unspecified)
