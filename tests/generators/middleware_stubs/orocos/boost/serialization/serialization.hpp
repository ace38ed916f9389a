#pragma once
namespace boost { namespace serialization {
template<typename T> struct nvp {};
template<typename T> const nvp<T> make_nvp(const char * name, T & value);
template<typename Archive, typename T> void serialize(Archive & archive, T & value, unsigned int version);
} }
