#pragma once
#include <string>
namespace RTT { namespace types {
class TypeTransporter { public: virtual ~TypeTransporter(); };
class TypeInfo { public: bool addProtocol(int protocol_id, TypeTransporter * transporter); };
class TransportPlugin {
public:
  virtual ~TransportPlugin() {}
  virtual bool registerTransport(std::string type_name, TypeInfo * type) = 0;
  virtual std::string getTransportName() const = 0;
  virtual std::string getTypekitName() const = 0;
  virtual std::string getName() const = 0;
};
} }
