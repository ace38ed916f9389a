#pragma once
namespace boost { namespace serialization {
template<typename T> struct nvp {
  T & held;
  T & value() const { return held; }
  const T & const_value() const { return held; }
};
template<typename T> const nvp<T> make_nvp(const char *, T & value) { return nvp<T>{value}; }
} }
