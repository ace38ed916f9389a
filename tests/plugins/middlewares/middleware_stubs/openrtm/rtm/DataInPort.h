#pragma once
#include <string>
#include <rtm/DataFlowComponentBase.h>
#include <rtm/idl/BasicDataTypeSkel.h>
namespace RTC {
template<typename Data> class InPort : public InPortBase {
public:
  InPort(const char * name, Data & value) { static_cast<void>(name); static_cast<void>(value.tm.nsec); }
  bool isNew();
  bool read(std::string name = "");
};
}
