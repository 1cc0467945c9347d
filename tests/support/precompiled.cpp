// The headers that tests share are compiled with this file; see atomesh_precompile().
