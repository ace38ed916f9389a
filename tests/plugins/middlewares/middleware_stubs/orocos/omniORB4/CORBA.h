#pragma once
#include <cstdint>
namespace CORBA {
using Octet = unsigned char;
using ULong = std::uint32_t;
class OctetSeq {
public:
  ULong length() const;
  void length(ULong size);
  Octet & operator[](ULong index);
  const Octet & operator[](ULong index) const;
};
class Any {};
using Any_ptr = Any *;
}
bool operator>>=(const CORBA::Any & any, const CORBA::OctetSeq *& octets);
void operator<<=(CORBA::Any & any, const CORBA::OctetSeq & octets);
