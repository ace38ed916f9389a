#pragma once
#include <boost/serialization/nvp.hpp>
namespace boost { namespace serialization {
template<typename Archive, typename T> void serialize(Archive & archive, T & value, unsigned int version);
} }
