#pragma once

// The only way to include Vulkan; only render/*.cpp and the headers that they alone include do so,
// because this header costs 4 s and 0.4 GB of memory in every file. Failed calls throw
// vk::SystemError, which renderer.cpp turns into an Error. Without constructors the Vulkan structs
// are aggregates, so that code names the members it sets.

#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VULKAN_HPP_NO_STRUCT_SETTERS
#include <vulkan/vulkan_raii.hpp>
