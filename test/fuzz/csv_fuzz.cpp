#include "semantic_mht_slam/io/objects_file.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "support/square_drive.h"
#include "support/text_mutation.h"

namespace semantic_mht_slam {

FuzzTarget csvTarget() {
  const auto run = [classes = makeStreetClasses()](const std::string& bytes) {
    const FuzzedFile file(bytes);
    return readOrRefuse([&] { readObjects(file.path(), classes, 100); });
  };
  return {"csv",
          run,
          {"frame,class,x,y,z,score,sxx,sxy,sxz,syy,syz,szz\n0,pole,1,2,3,.5,1,0,0,1,0,1\n7,trunk,-4,5e1,6,,,,,,,\n",
           "class,frame,z,y,x,moving,points,size_x,size_y,size_z,colour\r\npole,99,1,2,3,1,50,.2,.2,3,red\r\n\r\n"
           "trunk,0,1,2,3,0,,,,,\r\n"},
          mutatedText};
}

}  // namespace semantic_mht_slam
