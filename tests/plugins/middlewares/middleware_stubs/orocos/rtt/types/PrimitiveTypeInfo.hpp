#pragma once
#include <string>
#include <rtt/types/Types.hpp>
namespace RTT { namespace types {
template<typename T, bool use_ostream = false>
class PrimitiveTypeInfo : public TypeInfoGenerator { public: explicit PrimitiveTypeInfo(const std::string & name); };
} }
