#pragma once
namespace RTT {
enum FlowStatus { NoData = 0, OldData = 1, NewData = 2 };
enum WriteStatus { WriteSuccess = 0, WriteFailure = 1, NotConnected = 2 };
enum SendStatus { SendFailure = -1, SendNotReady = 0, SendSuccess = 1 };
enum ExecutionThread { OwnThread, ClientThread };
}
