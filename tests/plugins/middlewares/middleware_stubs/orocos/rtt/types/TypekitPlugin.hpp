#pragma once
#include <string>
#include <rtt/types/TransportPlugin.hpp>
namespace RTT { namespace types {
class TypekitPlugin {
public:
  virtual ~TypekitPlugin() {}
  virtual bool loadTypes() = 0;
  virtual bool loadOperators() = 0;
  virtual bool loadConstructors() = 0;
  virtual bool loadGlobals() { return true; }
  virtual std::string getName() = 0;
};
void import_plugin(TypekitPlugin * plugin);
void import_plugin(TransportPlugin * plugin);
} }
#define ORO_TYPEKIT_PLUGIN(TYPEKIT) \
  extern "C" { bool load##TYPEKIT(void *); bool load##TYPEKIT(void *) { RTT::types::import_plugin(new TYPEKIT()); return true; } }
