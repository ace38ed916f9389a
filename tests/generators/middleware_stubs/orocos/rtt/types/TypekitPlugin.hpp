#pragma once
#include <string>
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
} }
#define ORO_TYPEKIT_PLUGIN(TYPEKIT) \
  extern "C" { bool loadTypekit(void *); bool loadTypekit(void *) { TYPEKIT().loadTypes(); return true; } }
