#pragma once
#include <rtm/DataFlowComponentBase.h>
#include <rtm/idl/BasicDataTypeSkel.h>
namespace RTC {
template<typename Data> class OutPort : public OutPortBase {
public:
  OutPort(const char * name, Data & value) { static_cast<void>(name); static_cast<void>(value.tm.nsec); }
  bool write();
};
}
