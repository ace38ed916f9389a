#pragma once
#include <string>
namespace RTT {
template<typename Component> class ComponentFactoryLoader { public: explicit ComponentFactoryLoader(const char * name); };
template<typename Component> Component * make_component(const std::string & name) { return new Component(name); }
}
#define ORO_JOIN_AGAIN(first, second) first ## second
#define ORO_JOIN(first, second) ORO_JOIN_AGAIN(first, second)
#define ORO_LIST_COMPONENT_TYPE(CLASS) \
  namespace { RTT::ComponentFactoryLoader<CLASS> ORO_JOIN(loader_, __LINE__)(#CLASS); \
  void * ORO_JOIN(maker_, __LINE__) = reinterpret_cast<void *>(&RTT::make_component<CLASS>); }
#define ORO_CREATE_COMPONENT_LIBRARY() extern "C" int loadRTTPlugin();
