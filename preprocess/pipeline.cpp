#include "preprocess/pipeline.h"
