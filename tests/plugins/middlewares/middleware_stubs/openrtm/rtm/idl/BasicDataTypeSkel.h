#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>
namespace CORBA {
using Boolean = bool;
using Octet = unsigned char;
using Short = std::int16_t;
using UShort = std::uint16_t;
using Long = std::int32_t;
using ULong = std::uint32_t;
using LongLong = std::int64_t;
using ULongLong = std::uint64_t;
using Float = float;
using Double = double;
char * string_dup(const char * text);
class SystemException {};
class String_member {
public:
  String_member & operator=(const char * text);
  operator const char *() const;
};
class String_var {
public:
  String_var(char * text);
  ~String_var();
  const char * in() const;
};
template<typename Item> class Sequence {
public:
  ULong length() const;
  void length(ULong size);
  Item & operator[](ULong index);
};
template<typename T> class Var {
public:
  Var(T * value);
  ~Var();
  const T & in() const;
};
}
namespace PortableServer { class RefCountServantBase { public: virtual ~RefCountServantBase(); }; }
namespace RTC {
struct Time { CORBA::ULong sec; CORBA::ULong nsec; };
struct TimedBoolean { Time tm; CORBA::Boolean data; };
struct TimedOctet { Time tm; CORBA::Octet data; };
struct TimedShort { Time tm; CORBA::Short data; };
struct TimedUShort { Time tm; CORBA::UShort data; };
struct TimedLong { Time tm; CORBA::Long data; };
struct TimedULong { Time tm; CORBA::ULong data; };
struct TimedFloat { Time tm; CORBA::Float data; };
struct TimedDouble { Time tm; CORBA::Double data; };
struct TimedString { Time tm; CORBA::String_member data; };
}
