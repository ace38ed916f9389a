#pragma once
#include <string>
#include <rtt/FlowStatus.hpp>
namespace RTT {
class ExecutionEngine;
class OperationInterfacePart;
template<typename Signature> class SendHandle {};
template<typename Signature> class OperationCaller;
template<typename Result, typename... Arguments>
class OperationCaller<Result(Arguments...)> {
public:
  explicit OperationCaller(const std::string & name);
  Result operator()(Arguments... arguments);
  SendHandle<Result(Arguments...)> send(Arguments... arguments);
  bool ready() const;
  void setCaller(ExecutionEngine * caller);
  OperationCaller & operator=(OperationInterfacePart * part);
};
}
