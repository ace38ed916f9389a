#pragma once
#include <string>
#include <rtt/types/Types.hpp>
namespace RTT { namespace types {
template<typename T, bool has_ostream = false>
class SequenceTypeInfo : public TypeInfoGenerator {
public:
  explicit SequenceTypeInfo(const std::string & name);
  typename T::reference look(T & value) { return value.front(); }
};
} }
