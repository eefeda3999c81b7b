#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

/// Expects std::invalid_argument with a message that holds `text`.
#define EXPECT_INVALID(statement, text)                               \
  try {                                                               \
    statement;                                                        \
    ADD_FAILURE() << "nothing was thrown, expected: " << (text);      \
  } catch (const std::invalid_argument& error) {                      \
    EXPECT_THAT(std::string(error.what()), testing::HasSubstr(text)); \
  }
