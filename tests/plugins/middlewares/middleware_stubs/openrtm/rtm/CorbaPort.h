#pragma once
#include <rtm/DataFlowComponentBase.h>
#include <rtm/idl/BasicDataTypeSkel.h>
namespace RTC {
class CorbaConsumerBase { public: virtual ~CorbaConsumerBase(); };
template<typename Interface> class CorbaConsumer : public CorbaConsumerBase { public: Interface * operator->(); };
class CorbaPort : public PortBase {
public:
  explicit CorbaPort(const char * name);
  bool registerProvider(const char * instance, const char * type, PortableServer::RefCountServantBase & provider);
  bool registerConsumer(const char * instance, const char * type, CorbaConsumerBase & consumer);
};
}
