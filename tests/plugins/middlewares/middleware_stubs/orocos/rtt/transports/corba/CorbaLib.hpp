#pragma once
#define ORO_CORBA_PROTOCOL_ID 1
