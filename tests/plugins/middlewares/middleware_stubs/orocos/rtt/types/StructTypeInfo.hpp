#pragma once
#include <string>
#include <boost/serialization/serialization.hpp>
#include <rtt/types/Types.hpp>
namespace RTT { namespace types {
struct Discovery {
  template<typename T> Discovery & operator&(const T & part);
};
template<typename T, bool has_ostream = false>
class StructTypeInfo : public TypeInfoGenerator {
public:
  explicit StructTypeInfo(const std::string & name) { static_cast<void>(name); }
  void look(T & value) { Discovery discovery; boost::serialization::serialize(discovery, value, 0u); }
};
} }
