#pragma once
namespace coil { class Properties { public: explicit Properties(const char * const defaults[]); }; }
namespace RTC {
class RTObject_impl;
class Manager;
using RtcNewFunc = RTObject_impl * (*)(Manager *);
using RtcDeleteFunc = void (*)(RTObject_impl *);
class Manager {
public:
  static Manager * init(int argc, char ** argv);
  void setModuleInitProc(void (*procedure)(Manager *));
  bool activateManager();
  void runManager(bool no_block = false);
  bool registerFactory(coil::Properties & profile, RtcNewFunc make, RtcDeleteFunc destroy);
};
template<typename Made> RTObject_impl * Create(Manager * manager) { return new Made(manager); }
template<typename Made> void Delete(RTObject_impl * component);
}
