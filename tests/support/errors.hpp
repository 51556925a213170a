// Tests of messages: what a call throws, as text.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "sim/error.hpp"

namespace understory {

/// Message of the Error of this kind that `call` throws; a test failure and "" when it throws none or another kind.
template <typename Call>
std::string message_of(ErrorKind kind, Call call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

}  // namespace understory
