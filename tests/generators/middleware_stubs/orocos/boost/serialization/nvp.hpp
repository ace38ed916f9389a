#pragma once
namespace boost { namespace serialization {
template<typename T> struct nvp { T & value() const; const T & const_value() const; };
template<typename T> const nvp<T> make_nvp(const char * name, T & value);
} }
