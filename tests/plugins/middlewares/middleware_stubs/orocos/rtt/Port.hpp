#pragma once
#include <string>
#include <rtt/FlowStatus.hpp>
namespace RTT {
namespace base {
class PortInterface {
public:
  explicit PortInterface(const std::string & name);
  virtual ~PortInterface();
  PortInterface & doc(const std::string & description);
};
class InputPortInterface : public PortInterface { public: using PortInterface::PortInterface; };
}
template<typename T>
class InputPort : public base::InputPortInterface {
public:
  explicit InputPort(const std::string & name = "unnamed");
  InputPort(const InputPort &) = delete;
  FlowStatus read(T & sample, bool copy_old_data = true);
};
template<typename T>
class OutputPort : public base::PortInterface {
public:
  explicit OutputPort(const std::string & name = "unnamed", bool keep_last_written_value = true);
  OutputPort(const OutputPort &) = delete;
  WriteStatus write(const T & sample);
};
}
