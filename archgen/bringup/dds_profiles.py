"""The profile of Fast DDS or Cyclone DDS with which the processes of a host are started: what of `discovery` no variable of ROS says."""

from __future__ import annotations

import ipaddress
from xml.sax.saxutils import escape

from archgen.derivation.wire.running_state import FAST_DDS, list_discovery_servers, list_peers
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.ros_distro import PAST_DISTROS, can_name_peers, is_ros_1

_LOOPBACK = "127.0.0.1"
_CYCLONE = "rmw_cyclonedds"
_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
"""Of Fast DDS 2, and of Fast DDS 3, which ROS has since Kilted."""
_CYCLONE_VARIABLE = "CYCLONEDDS_URI"
_OWN_WORDS = frozenset({*_VARIABLES, _CYCLONE_VARIABLE, "ROS_DISCOVERY_SERVER"})
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
        if self.variable == _CYCLONE_VARIABLE:
            # The first address is the loopback, which Cyclone DDS does not need: programs of one computer meet at its own.
            interfaces = "".join(
                f'\n        <NetworkInterface address="{escape(each)}"/>' for each in self.interfaces[1:]
            )
            interfaces = f"\n      <Interfaces>{interfaces}\n      </Interfaces>" if interfaces else ""
            own = self.interfaces[1:] or (_LOOPBACK,)
            peers = "".join(
                f'\n        <Peer Address="{escape(each)}"/>' for each in dict.fromkeys((*own, *self.peers))
            )
            return _CYCLONE_PROFILE.format(interfaces=interfaces, peers=peers)
        interfaces = "".join(f"\n          <address>{escape(each)}</address>" for each in self.interfaces)
        peers = "".join(
            f"\n            <locator><udpv4><address>{escape(each)}</address></udpv4></locator>" for each in self.peers
        )
        white_list = f"\n        <interfaceWhiteList>{interfaces}\n        </interfaceWhiteList>" if interfaces else ""
        builtin = f"\n        <builtin>\n          <initialPeersList>{peers}\n          </initialPeersList>\n        </builtin>"
        return _PROFILE.format(white_list=white_list, builtin=builtin if peers else "")


_CYCLONE_PROFILE = """\
<?xml version="1.0" encoding="UTF-8"?>
<!-- Which interface DDS uses, and whom it asks for others: from hosts, addresses and links. Made by archgen. -->
<CycloneDDS xmlns="https://cdds.io/config">
  <Domain Id="any">
    <General>{interfaces}
      <AllowMulticast>false</AllowMulticast>
    </General>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>100</MaxAutoParticipantIndex>
      <Peers>{peers}
      </Peers>
    </Discovery>
  </Domain>
</CycloneDDS>
"""
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
    servers = list_discovery_servers(architecture)
    if host is None or is_ros_1(architecture.distro) or not (servers or architecture.ros_discovery == "peers"):
        return None
    written = {each.name: str(each.value) for each in architecture.ros_environment} | dict(host.environment)
    middleware = written.get("RMW_IMPLEMENTATION", FAST_DDS)
    if not middleware.startswith((FAST_DDS, _CYCLONE)) or not _OWN_WORDS.isdisjoint(written):
        return None
    # Fast DDS takes no peer by a number of IPv6, as `archgen check` says; in Cyclone DDS it would need an interface of its own.
    others = (each for each in list_peers(architecture, host.id) if ":" not in each)
    peers = () if servers or can_name_peers(architecture.distro) else tuple(dict.fromkeys((_LOOPBACK, *others)))
    networks = [each for each in architecture.links.values() if host.id in each.connects and len(each.connects) > 1]
    # Its one address is that of one network: of a second one nobody says which interface it is.
    interfaces = (_LOOPBACK, host.network_name) if len(networks) <= 1 and _names_interface(host.network_name) else ()
    is_second = architecture.distro in PAST_DISTROS | {"humble", "jazzy"}
    variable = _CYCLONE_VARIABLE if middleware.startswith(_CYCLONE) else _VARIABLES[0 if is_second else 1]
    return DdsProfile(variable, interfaces, peers) if interfaces or peers else None


def record_dds_profile(architecture: Architecture, host_id: str | None) -> dict[str, str] | None:
    """Return the variable that names the profile of a host, what stands before its path there, and its text, for templates."""
    profile = find_dds_profile(architecture, host_id)
    scheme = "file://" if profile and profile.variable == _CYCLONE_VARIABLE else ""
    return {"variable": profile.variable, "scheme": scheme, "text": profile.write_xml()} if profile else None


def _names_interface(address: str) -> bool:
    """Whether an address is the number of one interface through which others are reached."""
    try:
        number = ipaddress.IPv4Address(address)
    except ValueError:
        return False
    return not (number.is_loopback or number.is_unspecified)
