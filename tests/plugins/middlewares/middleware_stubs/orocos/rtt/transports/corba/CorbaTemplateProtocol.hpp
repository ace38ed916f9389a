#pragma once
#include <rtt/transports/corba/CorbaConversion.hpp>
#include <rtt/types/TransportPlugin.hpp>
namespace RTT { namespace corba {
template<typename T>
class CorbaTemplateProtocol : public types::TypeTransporter {
public:
  virtual CORBA::Any * createAny(const T & value) const { return AnyConversion<T>::createAny(value); }
  virtual bool update(const CORBA::Any & any, T & value) const { return AnyConversion<T>::update(any, value); }
};
} }
