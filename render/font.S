// The bytes of the font that texts in pictures are drawn with, inside the program: ATOMESH_FONT is its file.
  .section .rodata
  .global atomesh_font_begin
  .global atomesh_font_end
  .balign 16
atomesh_font_begin:
  .incbin ATOMESH_FONT
atomesh_font_end:
  .byte 0
  .section .note.GNU-stack, "", %progbits
