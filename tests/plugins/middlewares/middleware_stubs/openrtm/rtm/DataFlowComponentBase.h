#pragma once
#include <rtm/Manager.h>
#define RTC_WARN(arguments) static_cast<void>(sizeof(rtclog.warn arguments))
namespace RTC {
using UniqueId = int;
enum ReturnCode_t { RTC_OK, RTC_ERROR, BAD_PARAMETER, UNSUPPORTED, OUT_OF_RESOURCES, PRECONDITION_NOT_MET };
class InPortBase { public: virtual ~InPortBase(); };
class OutPortBase { public: virtual ~OutPortBase(); };
class PortBase { public: virtual ~PortBase(); };
class RTObject_impl {
public:
  explicit RTObject_impl(Manager * manager);
  RTObject_impl(const RTObject_impl &) = delete;
  virtual ~RTObject_impl();
  virtual ReturnCode_t onInitialize();
  virtual ReturnCode_t onFinalize();
  virtual ReturnCode_t onActivated(UniqueId context);
  virtual ReturnCode_t onDeactivated(UniqueId context);
  virtual ReturnCode_t onExecute(UniqueId context);
  struct Logger { int warn(const char * format, ...); } rtclog;
  bool addInPort(const char * name, InPortBase & port);
  bool addOutPort(const char * name, OutPortBase & port);
  bool addPort(PortBase & port);
  template<typename Value>
  bool bindParameter(const char * name, Value & variable, const char * default_value, bool (*read)(Value &, const char *));
};
class DataFlowComponentBase : public RTObject_impl { public: explicit DataFlowComponentBase(Manager * manager); };
}
