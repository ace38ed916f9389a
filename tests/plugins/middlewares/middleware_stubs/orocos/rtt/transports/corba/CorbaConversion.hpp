#pragma once
#include <omniORB4/CORBA.h>
namespace RTT { namespace corba {
class CAnySequence {};
template<typename T> struct AnyConversion;
} }
